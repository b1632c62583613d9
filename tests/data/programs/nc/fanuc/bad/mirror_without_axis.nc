(expect: missing-word 2:1)
G51.1
