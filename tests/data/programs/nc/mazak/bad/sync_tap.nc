(expect: unsupported-word 4:1)
S1000 M03
G00 X0. Y0. Z1.
G84.2 Z-9. R1. F1.25
M30
