(expect: bad-parameter 2:1)
#3004=4
M30
