(expect: unsupported-word 2:1)
G12.1
