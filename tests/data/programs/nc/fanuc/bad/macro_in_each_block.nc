(expect: unsupported-word 2:1)
G66.1 P10 A1
M30
O0010
M99
