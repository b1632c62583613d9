(expect: modal-conflict 2:5)
M08 G65 P10 A1
M30
O0010
M99
