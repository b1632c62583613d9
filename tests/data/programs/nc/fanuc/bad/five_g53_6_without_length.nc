(expect: missing-word 3:1)
G68.2 X0 Y0 Z0 I0 J10 K0
G53.6
