(expect: unsupported-word 2:7)
G68.2 P4 X0 Y0 Z0 I0 J0 K0
