(expect: unsupported-word 5:1)
G66 P10
G91 G00 X1
O0010
G66 P10
M99
