(expect: arc-with-rotaries 2:1)
G02 X10 I5 C30 F100
