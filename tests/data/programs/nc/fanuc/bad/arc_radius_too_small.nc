(expect: bad-arc 2:1)
G02 X10 R4 F100
