(expect: bad-arithmetic 2:9)
#1=[1.5 AND 2]
