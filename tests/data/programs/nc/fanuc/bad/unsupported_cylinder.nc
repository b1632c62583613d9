(expect: unsupported-word 2:1)
G07.1 C20
M30
