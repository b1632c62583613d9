(expect: unsupported-word 2:1)
G54.2 P1
M30
