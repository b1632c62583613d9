(expect: unknown-word 2:1)
M88
