(expect: unsupported-word 2:5)
G10 L11 P1 R5
