"""What pages are made of: charts, small pictures, lines of tables and fields of forms. No route leads here."""
