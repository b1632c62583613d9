(expect: unsupported-word 2:13)
G68.2 P2 Q0 X1
