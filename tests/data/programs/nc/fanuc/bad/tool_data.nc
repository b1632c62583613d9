(expect: unsupported-word 2:5)
G10 L3
