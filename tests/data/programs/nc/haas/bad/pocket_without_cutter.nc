(expect: missing-word 4:1)
S1000 M03
G00 X0. Y0. Z1.
G13 I10. Z-1. F100.
M30
