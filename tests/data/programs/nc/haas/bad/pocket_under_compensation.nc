(expect: modal-conflict 5:1)
S1000 M03
G00 X0. Y0. Z1.
G41 D1
G13 D1 I10. Z-1. F100.
M30
