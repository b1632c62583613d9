(expect: unsupported-word 2:5)
G91 G16
