(expect: two-motion-words 2:1)
G01 G81 X1 Z-1 R1 F100
