(expect: bad-statement 2:13)
IF [1 EQ 1] G00 X1
