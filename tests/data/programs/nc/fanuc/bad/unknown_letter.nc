(expect: unknown-word 2:5)
G00 E1
