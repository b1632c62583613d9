(expect: unexpected-word 2:1)
A1 G65 P10
M30
O0010
M99
