(expect: bad-statement 2:1)
END1
