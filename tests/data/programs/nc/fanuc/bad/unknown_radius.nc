(expect: unknown-tool 2:5)
G41 D9 G01 X20 F100
