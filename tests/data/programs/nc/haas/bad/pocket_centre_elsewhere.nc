(expect: unsupported-word 4:5)
S1000 M03
G00 X0. Y0. Z1.
G13 X5. D1 I10. Z-1. F100.
M30
