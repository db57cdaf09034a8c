"""Custom macro B: variables, expressions, statements, macro calls (rulings, section 1)."""
