(expect: bad-arc 2:1)
G03 X10 I4 F100
