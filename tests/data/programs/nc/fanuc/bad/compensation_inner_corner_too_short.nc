(expect: compensation-gouge 4:1)
G41 D1 G01 X20 F100
X40
Y3
X0
Y-5
M30
