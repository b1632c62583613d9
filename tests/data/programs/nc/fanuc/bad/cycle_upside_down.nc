(expect: bad-cycle 2:1)
G81 X1 Z5 R2 F100
