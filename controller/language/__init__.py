"""Program text to typed commands."""
