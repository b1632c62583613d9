(expect: bad-parameter 2:1)
#5001=1
