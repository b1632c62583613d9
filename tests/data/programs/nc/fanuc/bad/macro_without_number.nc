(expect: missing-word 2:1)
G65 A1
