(expect: unknown-word 2:1)
G77
