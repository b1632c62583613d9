(expect: unexpected-word 2:10)
G68.2 X0 A5
