(expect: unsupported-word 4:10)
T2 M06
G68.2 X0 Y0 Z0 I0 J10 K0
G53.6 H2 R10
