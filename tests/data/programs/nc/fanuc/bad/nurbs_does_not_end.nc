(expect: bad-nurbs 2:1)
G06.2 P2 K0 X0 Y0 Z0 F100
K0 X10
