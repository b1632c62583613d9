(expect: unexpected-word 4:10)
S1000 M03
G00 X0. Y0. Z1.
G83 Z-9. I4. J1. K1. R1. F100.
M30
