(expect: unsupported-word 3:7)
G68.2 X0 Y0 Z0 I0 J10 K0
G53.1 P1
