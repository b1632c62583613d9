(expect: unsupported-word 2:9)
G91 G30 P3 Z0
M30
