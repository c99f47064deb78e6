"""Sessions as tables: CSV files of a session database, and recordings of CSV files."""
