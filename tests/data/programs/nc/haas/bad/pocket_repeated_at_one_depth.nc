(expect: modal-conflict 4:18)
S1000 M03
G00 X0. Y0. Z1.
G13 D1 I10. Z-1. L3 F100.
M30
