(expect: compensation-no-tool 2:1)
G41 G01 X20 F100
M30
