(expect: modal-conflict 3:1)
G66 P10
G00 X1 M98 P10
M30
O0010
M99
