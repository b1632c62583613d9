(expect: bad-corner 3:9)
G21 G17 G90 G94 F100
G1 X10. ,C2.
X2.
