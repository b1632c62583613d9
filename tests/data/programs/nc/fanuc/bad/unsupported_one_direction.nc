(expect: unsupported-word 2:1)
G60 X1
