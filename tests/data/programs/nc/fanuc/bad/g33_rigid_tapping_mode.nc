(expect: unsupported-word 2:1)
G63
M30
