(expect: unknown-word 2:1)
G43.4 H1
M30
