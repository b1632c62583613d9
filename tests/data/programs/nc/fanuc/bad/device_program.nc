(expect: unsupported-word 2:1)
M198 P1
M30
