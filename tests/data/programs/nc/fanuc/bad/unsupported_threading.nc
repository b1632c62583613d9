(expect: unsupported-word 2:1)
G33 Z-5 F1
M30
