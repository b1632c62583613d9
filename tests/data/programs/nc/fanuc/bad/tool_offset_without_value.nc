(expect: missing-word 2:1)
G10 L10 P1
