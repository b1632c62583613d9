(expect: bad-nurbs 5:1)
G06.2 P2 K1 X0 Y0 Z0 F100
K1 X10
K0
K0
