(expect: modal-conflict 2:1)
G68.4 X0 Y0 Z0 I0 J10 K0
M30
