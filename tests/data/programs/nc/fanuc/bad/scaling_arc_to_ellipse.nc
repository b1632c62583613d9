(expect: bad-arc 4:1)
G51 X0 Y0 Z0 I2. J1. K1.
G00 X1 Y0
G02 X2 Y1 R1 F100
