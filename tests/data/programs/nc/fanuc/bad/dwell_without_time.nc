(expect: missing-word 2:1)
G04
