(expect: unsupported-word 2:1)
G31 Z-5 F100
M30
