(expect: unsupported-word 2:1)
G187 P1
