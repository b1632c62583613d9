(expect: bad-vector 4:5)
T2 M06
G43.5 H2
G01 X1 I0 J0 K0 F100
