(expect: unsupported-word 2:1)
G68.5 X0. Y0. Z0. I0. J1. K0. R30.
M30
