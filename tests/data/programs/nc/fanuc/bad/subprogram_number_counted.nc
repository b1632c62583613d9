(expect: unknown-subprogram 2:5)
M98 P12345
M30
O12345
M99
