(expect: bad-expression 2:8)
#1=[1+2
