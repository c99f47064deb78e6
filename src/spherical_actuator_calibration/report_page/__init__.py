"""The page that render_report makes: its text (content), its pictures (figures), and both put together (page)."""
