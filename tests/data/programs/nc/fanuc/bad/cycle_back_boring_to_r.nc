(expect: modal-conflict 3:1)
G00 Z50
G99 G87 X1 Z-5 R-9 Q1 F100
M30
