(expect: axis-missing 2:5)
G00 A10
