(expect: unsupported-word 2:1)
G41.2 D1
M30
