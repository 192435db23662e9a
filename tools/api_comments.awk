# Shows a header's plain comments to Doxygen: `//` above a declaration documents it, `//` behind one documents what is before it.
# The comment at a file's beginning is the file's. A comment within a function's body documents nothing.
FILENAME !~ /\.h$/ { print; next }
NR == 1 && /^\/\// { print "/// \\file"; head = 1 }
/^[ \t]*\/\/ ?namespace/ { print; next }
/^[ \t]*\/\/[^\/!]/ { sub(/\/\//, "///"); print; next }
/^[ \t]*\/\/$/ { sub(/\/\//, "///"); print; next }
/^}.*\/\/ namespace/ { print; next }
/[;,{}] +\/\/ / && !/"[^"]*\/\/[^"]*"/ { sub(/ +\/\/ /, "  ///< "); print; next }
{ print }
