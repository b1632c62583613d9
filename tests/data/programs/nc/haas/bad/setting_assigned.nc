(expect: bad-parameter 2:1)
#20085=1
M30
