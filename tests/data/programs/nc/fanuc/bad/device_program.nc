(expect: unknown-subprogram 2:1)
M198 P1
M30
O0001
M99
