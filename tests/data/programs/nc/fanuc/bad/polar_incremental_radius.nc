(expect: unsupported-word 4:5)
G16
G00 X10 Y0
G91 X5
