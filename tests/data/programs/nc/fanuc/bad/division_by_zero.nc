(expect: bad-arithmetic 2:5)
#1=1/0
