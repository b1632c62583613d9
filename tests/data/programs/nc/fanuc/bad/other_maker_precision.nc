(expect: unsupported-word 2:1)
G332 R1
