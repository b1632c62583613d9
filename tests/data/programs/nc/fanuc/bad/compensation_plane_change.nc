(expect: compensation-plane 4:1)
G01 X5 F100
G41 D1 X20
G18
M30
