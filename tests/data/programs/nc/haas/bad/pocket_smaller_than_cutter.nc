(expect: bad-pocket 4:8)
S1000 M03
G00 X0. Y0. Z1.
G13 D1 I3. Z-1. F100.
M30
