(expect: unexpected-word 2:10)
G68.2 I0 R5
