(expect: missing-word 2:1)
G06.2 P4 X0 Y0 Z0 F100
