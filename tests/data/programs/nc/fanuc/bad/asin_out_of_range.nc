(expect: bad-arithmetic 2:6)
#100=ASIN[1.5]
M30
