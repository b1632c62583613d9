(expect: missing-word 2:1)
G68.2 P1 X0 Y0 Z0 I10 J10
