(expect: missing-word 4:13)
S1000 M03
G00 X0. Y0. Z1.
G13 D1 I10. Q2. Z-1. F100.
M30
