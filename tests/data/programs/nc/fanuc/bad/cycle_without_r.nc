(expect: missing-word 2:1)
G81 X1 Z-2 F100
