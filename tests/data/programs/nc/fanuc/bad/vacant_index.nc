(expect: undefined-parameter 2:7)
G00 X#[#1]
M30
