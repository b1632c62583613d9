(expect: modal-conflict 3:5)
G66 P10
G91 G28 Z0
M30
O0010
M99
