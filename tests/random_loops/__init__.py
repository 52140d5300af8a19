"""The net: random loops, an independent checker, rewritings."""
