(expect: unsupported-word 2:1)
M96 P5 Q8
M30
