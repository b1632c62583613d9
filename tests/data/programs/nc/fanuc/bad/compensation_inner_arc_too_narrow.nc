(expect: compensation-gouge 3:5)
G41 D1 G01 X20 F100
G03 X20 Y6 I0 J3
G01 X0
M30
