(expect: unsupported-word 2:1)
G254
M30
