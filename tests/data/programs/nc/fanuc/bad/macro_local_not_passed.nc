(expect: undefined-parameter 5:6)
G65 P10 A1
M30
O0010
G00 X#2
M99
