(expect: bad-nurbs 4:1)
G06.2 P4 K0 X0 Y0 Z0 F100
K0 X10
G01 X20
