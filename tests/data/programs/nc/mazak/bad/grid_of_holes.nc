(expect: unsupported-word 2:1)
G37.1 X0. Y0. I5. P3 J5. K2
M30
