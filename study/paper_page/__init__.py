"""Tables, figures and page of the paper's simulations. See ../render_paper_study."""
