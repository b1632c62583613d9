(expect: unexpected-word 2:5)
M99 L5
