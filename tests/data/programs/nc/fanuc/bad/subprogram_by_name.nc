(expect: unexpected-character 2:5)
M98 <SUB>
